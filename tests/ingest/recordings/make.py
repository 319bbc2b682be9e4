# Writes the recordings of this directory: python3 make.py DIRECTORY
import struct, sys
import numpy as np, scipy.io as sio
D=sys.argv[1]
t=np.arange(5)*0.04
alpha=np.array([1.5,2.0,np.nan,2.5,-1.0])
q=np.array([10,-20,30,-40,50],dtype=np.int16)
data=np.column_stack([t,alpha,q.astype(float)])
rec={'t':t.reshape(-1,1),'alpha':alpha.reshape(-1,1),'q':q.reshape(-1,1),'inner':{'acc':np.arange(15,dtype=np.float32).reshape(5,3)}}
cells=np.empty((1,2),dtype=object); cells[0,0]=1.0; cells[0,1]="a"
def save(name,compressed,**v): sio.savemat(f"{D}/{name}",v,do_compression=compressed)
save("plain.mat",False,t=t.reshape(-1,1),alpha=alpha.reshape(1,-1),q=q.reshape(-1,1),k=np.zeros((1,1,5)))
save("compressed.mat",True,data=data,note="made by scipy",rec=rec,z=np.array([[1+2j]]),cells=cells,sparse=__import__("scipy.sparse").sparse.eye(2).tocsc(),recs=np.array([(1,),(2,)],dtype=[("t",float)]))
save("one_matrix.mat",True,fAttasElv1=data)
# the other byte order, which scipy does not write
def element(kind,b):
    return struct.pack(">II",kind,len(b))+b+b"\0"*(-len(b)%8)
def matrix(name,cls,kind,fmt,a):
    body=element(6,struct.pack(">II",cls,0))+element(5,struct.pack(">ii",*a.shape))
    n=name.encode()
    body+=(struct.pack(">HH",len(n),1)+n.ljust(4,b"\0")) if len(n)<=4 else element(1,n)
    body+=element(kind,a.astype(fmt).tobytes(order="F"))
    return element(14,body)
head=b"MATLAB 5.0 MAT-file, big-endian by hand".ljust(116)+b"\0"*8+struct.pack(">H",0x100)+b"MI"
open(f"{D}/big_endian.mat","wb").write(head+matrix("t",6,9,">f8",t.reshape(-1,1))+matrix("alpha",7,7,">f4",alpha.reshape(-1,1))+matrix("q",10,3,">i2",q.reshape(-1,1)))
